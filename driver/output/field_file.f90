!> Fields of a chain over time, in one format for all sizes: BASE_fields.bin holds nothing but
!> numbers of 64 bits, a record for each time,
!>
!>     time, slip rate of each block, slip of each block, friction coefficient of each block,
!>
!> and BASE_fields.xdmf describes it to ParaView as a map over blocks and time. Records are only
!> ever added: what a killed run has written stays readable, and a resumed one goes on behind it.
module field_file
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use friction_mod, only : statev_mu, statev_slip
    use number_text, only : full_row
    use slider_system, only : slider_state
    use text_file, only : output_file
    implicit none
    private

    public :: chain_fields, field_record_bytes, sample_fields

    integer, parameter :: fields = 3
    character(len=9), parameter :: names(fields) = ['slip_rate', 'slip     ', 'mu       ']

    type :: chain_fields
        type(output_file) :: file
        character(len=:), allocatable :: base   !! of the names, with the directory
        integer :: n_blocks = 0
    contains
        procedure :: create, go_on, write_record, finish
        procedure, private :: records, write_description
    end type chain_fields

contains

    pure function field_record_bytes(n_blocks) result(bytes)
        integer, intent(in) :: n_blocks
        integer(int64) :: bytes

        bytes = 8 * (1 + fields * int(n_blocks, int64))
    end function field_record_bytes

    subroutine create(self, base, n_blocks)
        class(chain_fields), intent(inout) :: self
        character(len=*), intent(in) :: base
        integer, intent(in) :: n_blocks

        self%base = base
        self%n_blocks = n_blocks
        call self%file%create(base // '_fields.bin')
    end subroutine create

    !> Goes on in the file of an interrupted run, behind its first bytes.
    subroutine go_on(self, base, n_blocks, bytes)
        class(chain_fields), intent(inout) :: self
        character(len=*), intent(in) :: base
        integer, intent(in) :: n_blocks
        integer(int64), intent(in) :: bytes

        self%base = base
        self%n_blocks = n_blocks
        call self%file%go_on(base // '_fields.bin', bytes)
    end subroutine go_on

    !> The blocks after the step from `old` to `new`; slip rates are those of the step.
    subroutine write_record(self, old, new)
        class(chain_fields), intent(inout) :: self
        type(slider_state), intent(in) :: old, new
        real(dp) :: dt

        dt = max(new%time - old%time, tiny(dt))
        call self%file%write_numbers([new%time])
        call self%file%write_numbers((new%statev(:, statev_slip) - old%statev(:, statev_slip)) / dt)
        call self%file%write_numbers(new%statev(:, statev_slip))
        call self%file%write_numbers(new%statev(:, statev_mu))
        call self%file%flush_lines()
    end subroutine write_record

    pure function records(self) result(n)
        class(chain_fields), intent(in) :: self
        integer(int64) :: n

        n = self%file%bytes / field_record_bytes(self%n_blocks)
    end function records

    subroutine finish(self)
        class(chain_fields), intent(inout) :: self

        if (self%n_blocks == 0) return
        call self%file%finish()
        call self%write_description()
        self%n_blocks = 0
    end subroutine finish

    !> BASE_fields.dat for a picture: slip rates in cells of blocks and times, in each the largest;
    !> `time block slip_rate`, an empty line after each time.
    subroutine sample_fields(base, n_blocks, done)
        character(len=*), intent(in) :: base
        integer, intent(in) :: n_blocks
        logical, intent(out) :: done
        integer, parameter :: most_cells = 300   !! in either direction
        type(output_file) :: sample
        real(dp) :: time, rate(n_blocks)
        real(dp), allocatable :: largest(:)
        integer(int64) :: records, bytes, i
        integer :: unit, status, times, blocks, k

        open (newunit=unit, file=base // '_fields.bin', access='stream', form='unformatted', &
            status='old', action='read', iostat=status)
        done = status == 0
        if (.not. done) return
        inquire (unit=unit, size=bytes)
        records = bytes / field_record_bytes(n_blocks)
        times = int((records - 1) / most_cells) + 1
        blocks = (n_blocks - 1) / most_cells + 1
        largest = spread(0.0_dp, 1, (n_blocks - 1) / blocks + 1)
        call sample%create(base // '_fields.dat')
        do i = 1, records
            read (unit, pos=1 + (i - 1) * field_record_bytes(n_blocks), iostat=status) time, rate
            if (status /= 0) exit
            do k = 1, size(largest)
                largest(k) = max(largest(k), maxval(rate(1 + (k - 1) * blocks:min(n_blocks, &
                    k * blocks))))
            end do
            if (mod(i, int(times, int64)) > 0 .and. i < records) cycle
            do k = 1, size(largest)
                call sample%write_line(full_row([time, 1.0_dp + (k - 1) * blocks, largest(k)], ' '))
            end do
            call sample%write_line('')
            largest = 0.0_dp
        end do
        close (unit)
        call sample%finish()
        done = status == 0 .and. .not. sample%failed
    end subroutine sample_fields

    !> Each number of a map is found in the records by its place: start, stride, count.
    subroutine write_description(self)
        class(chain_fields), intent(inout) :: self
        character(len=*), parameter :: item = &
            '<DataItem ItemType="HyperSlab" Dimensions="', &
            places = '"><DataItem Dimensions="3 2" Format="XML">'
        type(output_file) :: description
        character(len=80) :: map
        character(len=400) :: data
        character(len=20) :: number
        integer :: i

        write (map, '(i0, 1x, i0)') self%records(), self%n_blocks
        write (data, '(a, i0, 1x, i0, 3a)') '<DataItem Format="Binary" NumberType="Float" ' &
            // 'Precision="8" Endian="Little" Dimensions="', self%records(), &
            1 + fields * self%n_blocks, '">', &
            self%base(index(self%base, '/', back=.true.) + 1:), '_fields.bin</DataItem></DataItem>'
        call description%create(self%base // '_fields.xdmf')
        call description%write_line('<?xml version="1.0"?>')
        call description%write_line('<Xdmf Version="2.0"><Domain><Grid Name="chain">')
        call description%write_line('<Topology TopologyType="2DRectMesh" Dimensions="' &
            // trim(map) // '"/>')
        write (number, '(i0)') self%n_blocks
        call description%write_line('<Geometry GeometryType="VXVY"><DataItem Format="XML" ' &
            // 'Dimensions="' // trim(number) // '">')
        do i = 1, self%n_blocks
            write (number, '(i0)') i
            call description%write_line(trim(number))
        end do
        write (number, '(i0)') self%records()
        call description%write_line('</DataItem>' // item // trim(number) // places &
            // '0 0 1 1 ' // trim(number) // ' 1</DataItem>' // trim(data) // '</Geometry>')
        do i = 1, fields
            write (number, '(i0)') 1 + (i - 1) * self%n_blocks
            call description%write_line('<Attribute Name="' // trim(names(i)) &
                // '" Center="Node">' // item // trim(map) // places // '0 ' // trim(number) &
                // ' 1 1 ' // trim(map) // '</DataItem>' // trim(data) // '</Attribute>')
        end do
        call description%write_line('</Grid></Domain></Xdmf>')
        call description%finish()
        self%file%failed = self%file%failed .or. description%failed
    end subroutine write_description

end module field_file
