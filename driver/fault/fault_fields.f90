!> Fields of the fault over time: BASE_fields.bin holds nothing but numbers of 64 bits, a record for
!> each time,
!>
!>     time, slip rate of each cell, slip, traction, internal variable,
!>
!> cells along strike first, and BASE_fields.xdmf describes it to ParaView. Each process writes its
!> own rows. Records are only ever added: what a killed run has written stays readable, and a
!> resumed one goes on behind it, on any number of processes.
module fault_fields
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use fault_problem, only : fault, fault_state
    use platform, only : truncate_file
    use processes, only : team
    use text_file, only : output_file
    implicit none
    private

    public :: field_file

    integer, parameter :: fields = 4, word = 8
    character(len=9), parameter :: names(fields) = ['slip_rate', 'slip     ', 'traction ', &
        'internal ']

    type :: field_file
        character(len=:), allocatable :: base   !! of the files' names, with the directory
        integer :: records = 0
        logical :: failed = .false.             !! on some process
    contains
        procedure :: create, go_on, write_record, describe
    end type field_file

contains

    pure function record_bytes(here) result(bytes)
        type(fault), intent(in) :: here
        integer(int64) :: bytes

        bytes = word * (1 + fields * int(here%plan%nx, int64) * here%plan%nz)
    end function record_bytes

    subroutine create(self, together, base)
        class(field_file), intent(inout) :: self
        type(team), intent(in) :: together
        character(len=*), intent(in) :: base
        integer :: unit, status

        self%base = base
        status = 0
        if (together%rank == 0) then
            open (newunit=unit, file=base // '_fields.bin', access='stream', form='unformatted', &
                status='replace', action='write', iostat=status)
            if (status == 0) close (unit)
        end if
        self%failed = together%any_of(status /= 0)
    end subroutine create

    !> Goes on behind the records that a checkpoint knows of.
    subroutine go_on(self, here, together, base, records)
        class(field_file), intent(inout) :: self
        type(fault), intent(in) :: here
        type(team), intent(in) :: together
        character(len=*), intent(in) :: base
        integer, intent(in) :: records
        logical :: cut

        self%base = base
        self%records = records
        cut = .true.
        if (together%rank == 0) cut = truncate_file(base // '_fields.bin', records &
            * record_bytes(here))
        self%failed = together%any_of(.not. cut)
    end subroutine go_on

    subroutine write_record(self, here, together, state)
        class(field_file), intent(inout) :: self
        type(fault), intent(in) :: here
        type(team), intent(in) :: together
        type(fault_state), intent(in) :: state
        integer(int64) :: place, row, bytes
        integer :: unit, status, k

        if (self%failed) return
        open (newunit=unit, file=self%base // '_fields.bin', access='stream', form='unformatted', &
            status='old', action='readwrite', iostat=status)
        place = 1 + self%records * record_bytes(here)
        if (together%rank == 0 .and. status == 0) write (unit, pos=place, iostat=status) state%time
        row = word * int(here%plan%nx, int64)
        place = place + word + row * (here%part%first - 1)
        do k = 1, fields
            if (status /= 0 .or. here%n == 0) exit
            select case (k)
            case (1)
                write (unit, pos=place, iostat=status) state%rate
            case (2)
                write (unit, pos=place, iostat=status) state%slip
            case (3)
                write (unit, pos=place, iostat=status) state%traction
            case default
                write (unit, pos=place, iostat=status) state%memory
            end select
            place = place + row * here%plan%nz
        end do
        close (unit)
        self%records = self%records + 1
        call together%wait()
        inquire (file=self%base // '_fields.bin', size=bytes)
        self%failed = together%any_of(status /= 0 .or. bytes /= self%records * record_bytes(here))
        if (.not. self%failed) return
        self%records = self%records - 1   ! nothing is left of a record that is not whole
        if (together%rank == 0) status = merge(0, 1, truncate_file(self%base // '_fields.bin', &
            self%records * record_bytes(here)))
    end subroutine write_record

    !> The description for ParaView, of all records so far.
    subroutine describe(self, here, together)
        class(field_file), intent(in) :: self
        type(fault), intent(in) :: here
        type(team), intent(in) :: together
        real(dp) :: time
        type(output_file) :: file
        character(len=200) :: mesh, spacing, cells
        integer(int64) :: place
        character(len=24) :: number, time_text
        integer :: i, k, unit, status

        if (together%rank /= 0) return
        open (newunit=unit, file=self%base // '_fields.bin', access='stream', form='unformatted', &
            status='old', action='read', iostat=status)
        if (status /= 0) return
        associate (plan => here%plan)
            write (mesh, '(i0, 1x, i0)') plan%nz + 1, plan%nx + 1
            write (cells, '(i0, 1x, i0)') plan%nz, plan%nx
            write (spacing, '(es22.15, 1x, es22.15)') plan%dz(), plan%dx()
        end associate
        call file%create(self%base // '_fields.xdmf')
        call file%write_line('<?xml version="1.0"?><Xdmf Version="2.0"><Domain>')
        call file%write_line('<Grid GridType="Collection" CollectionType="Temporal">')
        do i = 1, self%records
            read (unit, pos=1 + (i - 1) * record_bytes(here), iostat=status) time
            if (status /= 0) exit
            write (time_text, '(es24.16e3)') time
            call file%write_line('<Grid><Time Value="' // trim(adjustl(time_text)) // '"/>')
            call file%write_line('<Topology TopologyType="2DCoRectMesh" Dimensions="' &
                // trim(mesh) // '"/>')
            call file%write_line('<Geometry GeometryType="ORIGIN_DXDY"><DataItem Dimensions="2" ' &
                // 'Format="XML">0 0</DataItem>')
            call file%write_line('<DataItem Dimensions="2" Format="XML">' // trim(spacing) &
                // '</DataItem></Geometry>')
            do k = 1, fields
                place = (i - 1) * record_bytes(here) + word * (1 + (k - 1) &
                    * int(here%plan%nx, int64) * here%plan%nz)
                write (number, '(i0)') place
                call file%write_line('<Attribute Name="' // trim(names(k)) // '" Center="Cell">' &
                    // '<DataItem Dimensions="' // trim(cells) // '" NumberType="Float" ' &
                    // 'Precision="8" Format="Binary" Endian="Little" Seek="' // trim(number) &
                    // '">' // file_name(self%base) // '_fields.bin</DataItem></Attribute>')
            end do
            call file%write_line('</Grid>')
        end do
        close (unit)
        call file%write_line('</Grid></Domain></Xdmf>')
        call file%finish()
    end subroutine describe

    pure function file_name(path) result(name)
        character(len=*), intent(in) :: path
        character(len=:), allocatable :: name

        name = path(index(path, '/', back=.true.) + 1:)
    end function file_name

end module fault_fields
