!> Fields of the fault over time, in the files of field_file: slip rate, slip, traction and internal
!> variable of all cells. Each process writes its own rows.
module fault_fields
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use fault_problem, only : fault, fault_state
    use field_file, only : field_parts, field_record_bytes, whole_words
    use platform, only : rename_file
    use processes, only : team
    use text_file, only : output_file
    implicit none
    private

    public :: fault_field_file

    integer, parameter :: slip_rate = 1, slip = 2, traction = 3, internal = 4
    character(len=9), parameter :: names(4) = ['slip_rate', 'slip     ', 'traction ', 'internal ']

    type :: fault_field_file
        type(field_parts) :: parts
    contains
        procedure :: prepare, go_on, write_record, save, bytes
        procedure, private :: describe
    end type fault_field_file

contains

    !> For the records of a new run.
    subroutine prepare(self, here, base)
        class(fault_field_file), intent(inout) :: self
        type(fault), intent(in) :: here
        character(len=*), intent(in) :: base
        integer :: i

        associate (plan => here%plan)
            call self%parts%prepare(base, names, ['z', 'x'], plan%z_of([(i, i = 1, plan%nz)]), &
                plan%x_of([(i, i = 1, plan%nx)]))
        end associate
        call self%parts%take_rows(here%part%first, here%part%rows)
    end subroutine prepare

    !> Goes on behind the records that a checkpoint knows of.
    subroutine go_on(self, here, together, base, records)
        class(fault_field_file), intent(inout) :: self
        type(fault), intent(in) :: here
        type(team), intent(in) :: together
        character(len=*), intent(in) :: base
        integer(int64), intent(in) :: records

        call self%prepare(here, base)
        if (together%rank == 0) call self%parts%find(records)
        if (agree(self, together)) return
        call self%parts%read_own(records)
        if (agree(self, together)) return
    end subroutine go_on

    subroutine write_record(self, here, together, state)
        class(fault_field_file), intent(inout) :: self
        type(fault), intent(in) :: here
        type(team), intent(in) :: together
        type(fault_state), intent(in) :: state

        if (self%parts%failed) return
        call self%parts%next(state%time)
        call self%parts%put(slip_rate, state%rate)
        call self%parts%put(slip, state%slip)
        call self%parts%put(traction, state%traction)
        call self%parts%put(internal, state%memory)
        if (self%parts%is_full()) call self%save(here, together)
    end subroutine write_record

    !> Brings all records into the files, and describes them.
    subroutine save(self, here, together)
        class(fault_field_file), intent(inout) :: self
        type(fault), intent(in) :: here
        type(team), intent(in) :: together

        if (self%parts%is_saved() .or. self%parts%failed) return
        if (together%rank == 0) call self%parts%lay_out()
        if (.not. agree(self, together)) then
            call self%parts%write_own()
            if (.not. agree(self, together)) then
                if (together%rank == 0) call self%parts%publish()
                if (agree(self, together)) return
                self%parts%saved = self%parts%records
                if (together%rank == 0) call self%describe(here)
                if (agree(self, together)) return
                return
            end if
        end if
        if (together%rank == 0) call self%parts%withdraw()
    end subroutine save

    !> Of all records so far.
    pure integer(int64) function bytes(self, here) result(total)
        class(fault_field_file), intent(in) :: self
        type(fault), intent(in) :: here

        total = self%parts%records * field_record_bytes(int(here%plan%nx, int64) * here%plan%nz, &
            size(names))
    end function bytes

    !> What one process has found is so for all; the first one's places are.
    logical function agree(self, together) result(failed)
        class(fault_field_file), intent(inout) :: self
        type(team), intent(in) :: together
        real(dp) :: places(size(self%parts%places))

        places = real(self%parts%places, dp)   ! exact below 9e15
        call together%share(places)
        self%parts%places = int(places, int64)
        failed = together%any_of(self%parts%failed)
        self%parts%failed = failed
    end function agree

    !> BASE_fields.xdmf, for ParaView: a grid for each time.
    subroutine describe(self, here)
        class(fault_field_file), intent(inout) :: self
        type(fault), intent(in) :: here
        type(output_file) :: file
        character(len=:), allocatable :: name
        character(len=48) :: spacing, origin
        character(len=24) :: time
        integer(int64) :: i, cells(2)
        integer :: k

        cells = [here%plan%nz, here%plan%nx]
        write (spacing, '(es23.15e3, 1x, es23.15e3)') here%plan%dz(), here%plan%dx()
        write (origin, '(es23.15e3, 1x, es23.15e3)') 0.0_dp, here%plan%x_of(1) - 0.5_dp &
            * here%plan%dx()
        name = self%parts%base // '_fields.xdmf'
        call file%create(name // '.new')
        call file%write_line('<?xml version="1.0"?><Xdmf Version="2.0"><Domain>')
        call file%write_line('<Grid GridType="Collection" CollectionType="Temporal">')
        do i = 1, self%parts%saved
            write (time, '(es24.16e3)') self%parts%times(i)
            call file%write_line('<Grid><Time Value="' // trim(adjustl(time)) // '"/>')
            call file%write_line('<Topology TopologyType="2DCoRectMesh" Dimensions="' &
                // whole_words(cells + 1) // '"/>')
            call file%write_line('<Geometry GeometryType="ORIGIN_DXDY"><DataItem Dimensions="2" ' &
                // 'Format="XML">' // trim(origin) // '</DataItem>')
            call file%write_line('<DataItem Dimensions="2" Format="XML">' // trim(spacing) &
                // '</DataItem></Geometry>')
            do k = 1, size(names)
                call file%write_line('<Attribute Name="' // trim(names(k)) // '" Center="Cell">' &
                    // self%parts%data_item(k, i, 1_int64) // '</Attribute>')
            end do
            call file%write_line('</Grid>')
        end do
        call file%write_line('</Grid></Domain></Xdmf>')
        call file%finish()
        self%parts%failed = file%failed
        if (.not. self%parts%failed) self%parts%failed = .not. rename_file(name // '.new', name)
    end subroutine describe

end module fault_fields
